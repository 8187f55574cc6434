; What is paid with a coin is paid once; and a gate may let through in one direction only.
(define (domain shop)
  (:requirements :strips :typing)
  (:types coin ware region)
  ; EXOGENOUS: have
  (:predicates
    (have ?c - coin) ; NL: [0] is in my purse
    (bought ?w - ware) ; NL: [0] is bought
    (robot-at ?r - region) ; NL: the robot is in [0]
    (way ?a - region ?b - region) ; NL: there is a way from [0] to [1]
    (sells ?r - region ?w - ware)) ; NL: [0] has [1] for sale
  (:action go
    :parameters (?a - region ?b - region)
    :precondition (and (robot-at ?a) (way ?a ?b))
    :effect (and (robot-at ?b) (not (robot-at ?a))))
  (:action buy
    :parameters (?w - ware ?c - coin ?r - region)
    :precondition (and (have ?c) (robot-at ?r) (sells ?r ?w))
    :effect (and (bought ?w) (not (have ?c)))))
