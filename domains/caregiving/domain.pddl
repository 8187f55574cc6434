; Caregiving: a robot that fetches, serves and tells residents things.
;
; `object` is declared as a type of its own here: a thing that the robot can grasp. It is not
; the root of the other types, so (at table table) is a type error.
;
; Two kinds of comment are read by Polaris NL. One lists atoms of which at most one holds for each
; value of the variables, with `_` counted over everything; what follows from the operators (an
; object is in one place) is found and needn't be listed. The other lists the predicates that a
; person brings about, or may bring about as well as the robot.
(define (domain caregiving)
  (:requirements :adl)
  (:types object container surface region person message)

  ; MUTEX: (person-in ?p _)
  ; MUTEX: (acknowledged ?m) (dismissed ?m)
  ; EXOGENOUS: person-in at in has open acknowledged dismissed
  (:predicates
    (robot-at ?r - region)
    (person-in ?p - person ?r - region)
    ; static: nothing changes them
    (located ?x - (either surface container) ?r - region)
    (connected ?a - region ?b - region)
    ; an object is in exactly one of these
    (at ?o - object ?s - surface)
    (in ?o - object ?c - container)
    (holding ?o - object)
    (has ?p - person ?o - object)
    (hand-empty)
    (open ?c - container)
    (is-full ?o - object)
    (food-station ?s - surface)
    (alerted-to ?p - person ?m - message)
    (acknowledged ?m - message)
    (dismissed ?m - message))

  (:action move
    :parameters (?from - region ?to - region)
    :precondition (and (robot-at ?from) (connected ?from ?to))
    :effect (and (not (robot-at ?from)) (robot-at ?to)))

  (:action pick
    :parameters (?o - object ?s - surface)
    :precondition (and (hand-empty) (at ?o ?s)
      (exists (?r - region) (and (robot-at ?r) (located ?s ?r))))
    :effect (and (not (hand-empty)) (not (at ?o ?s)) (holding ?o)))

  (:action place
    :parameters (?o - object ?s - surface)
    :precondition (and (holding ?o)
      (exists (?r - region) (and (robot-at ?r) (located ?s ?r))))
    :effect (and (not (holding ?o)) (at ?o ?s) (hand-empty)))

  ; Handles need the gripper, so opening and closing take an empty hand.
  (:action open-container
    :parameters (?c - container)
    :precondition (and (hand-empty) (not (open ?c))
      (exists (?r - region) (and (robot-at ?r) (located ?c ?r))))
    :effect (open ?c))

  (:action close-container
    :parameters (?c - container)
    :precondition (and (hand-empty) (open ?c)
      (exists (?r - region) (and (robot-at ?r) (located ?c ?r))))
    :effect (not (open ?c)))

  (:action take-out
    :parameters (?o - object ?c - container)
    :precondition (and (hand-empty) (in ?o ?c) (open ?c)
      (exists (?r - region) (and (robot-at ?r) (located ?c ?r))))
    :effect (and (not (hand-empty)) (not (in ?o ?c)) (holding ?o)))

  (:action put-in
    :parameters (?o - object ?c - container)
    :precondition (and (holding ?o) (open ?c)
      (exists (?r - region) (and (robot-at ?r) (located ?c ?r))))
    :effect (and (not (holding ?o)) (in ?o ?c) (hand-empty)))

  (:action hand-over
    :parameters (?o - object ?p - person)
    :precondition (and (holding ?o)
      (exists (?r - region) (and (robot-at ?r) (person-in ?p ?r))))
    :effect (and (not (holding ?o)) (has ?p ?o) (hand-empty)))

  (:action take-from
    :parameters (?o - object ?p - person)
    :precondition (and (hand-empty) (has ?p ?o)
      (exists (?r - region) (and (robot-at ?r) (person-in ?p ?r))))
    :effect (and (not (hand-empty)) (not (has ?p ?o)) (holding ?o)))

  (:action fill
    :parameters (?o - object ?s - surface)
    :precondition (and (holding ?o) (food-station ?s)
      (exists (?r - region) (and (robot-at ?r) (located ?s ?r))))
    :effect (is-full ?o))

  ; The region is a parameter, since where somebody is told something matters to people.
  (:action alert
    :parameters (?p - person ?m - message ?r - region)
    :precondition (and (robot-at ?r) (person-in ?p ?r))
    :effect (alerted-to ?p ?m)))
