; Balls and hands: three balls for two hands is a conflict of three goals, of which no two exclude each other.
(define (domain two-hands)
  (:requirements :strips :typing)
  (:types ball hand)
  (:predicates
    (in ?b - ball ?h - hand) ; NL: [0] is in the [1]
    (on-floor ?b - ball) ; NL: [0] is on the floor
    (free ?h - hand) ; NL: [0] is free
    (held ?b - ball)) ; NL: [0] is held up
  (:action grab
    :parameters (?b - ball ?h - hand)
    :precondition (and (on-floor ?b) (free ?h))
    :effect (and (in ?b ?h) (held ?b) (not (on-floor ?b)) (not (free ?h))))
  (:action drop
    :parameters (?b - ball ?h - hand)
    :precondition (in ?b ?h)
    :effect (and (on-floor ?b) (free ?h) (not (in ?b ?h)) (not (held ?b)))))
