; House: a wide domain for measuring the language side on sentences by people. It isn't shipped.
;
; Some things are two things at once, so three types of their own stand beside the usual six: a
; vessel can be carried and filled, a dish is carried and carries, a unit holds things and has a top.
; What stands in a room at no surface is in-room.
(define (domain house)
  (:requirements :adl)
  (:types vessel unit - container dish - surface
          object container surface region person message)

  ; MUTEX: (person-in ?p _)
  ; EXOGENOUS: person-in at in in-room near has open on is-clean is-full is-cold is-hot is-sliced
  (:predicates
    (robot-at ?r - (either region surface container))
    (person-in ?p - person ?r - region)
    (at ?o - (either object vessel dish) ?s - (either surface unit))
    (in ?o - (either object vessel dish) ?c - container)
    (in-room ?o - (either object vessel dish container surface) ?r - region)
    (near ?o - (either object vessel dish) ?x - (either object container surface person))
    (holding ?o - (either object vessel dish))
    (has ?p - person ?o - (either object vessel dish))
    (hand-empty)
    (open ?c - (either object container surface))
    (on ?x - (either object container surface))
    (found ?x - (either object container surface person))
    (followed ?p - person)
    (guided ?p - person ?r - (either region surface container))
    (alerted-to ?p - person ?m - message)
    (is-full ?o - (either object container))
    (is-clean ?o - (either object container surface))
    (is-hot ?o - (either object container))
    (is-cold ?o - (either object container))
    (is-sliced ?o - object))

  (:action move
    :parameters (?from - (either region surface container) ?to - (either region surface container))
    :precondition (robot-at ?from)
    :effect (and (not (robot-at ?from)) (robot-at ?to)))

  (:action pick
    :parameters (?o - (either object vessel dish) ?s - (either surface unit))
    :precondition (and (hand-empty) (at ?o ?s))
    :effect (and (not (hand-empty)) (not (at ?o ?s)) (holding ?o)))

  (:action place
    :parameters (?o - (either object vessel dish) ?s - (either surface unit))
    :precondition (holding ?o)
    :effect (and (not (holding ?o)) (at ?o ?s) (hand-empty)))

  (:action take-out
    :parameters (?o - (either object vessel dish) ?c - container)
    :precondition (and (hand-empty) (in ?o ?c) (open ?c))
    :effect (and (not (hand-empty)) (not (in ?o ?c)) (holding ?o)))

  (:action put-in
    :parameters (?o - (either object vessel dish) ?c - container)
    :precondition (and (holding ?o) (open ?c))
    :effect (and (not (holding ?o)) (in ?o ?c) (hand-empty)))

  (:action put-beside
    :parameters (?o - (either object vessel dish) ?x - (either object container surface person))
    :precondition (holding ?o)
    :effect (and (not (holding ?o)) (near ?o ?x) (hand-empty)))

  (:action take-into
    :parameters (?o - (either object vessel dish container surface) ?r - region)
    :precondition (robot-at ?r)
    :effect (in-room ?o ?r))

  (:action hand-over
    :parameters (?o - (either object vessel dish) ?p - person)
    :precondition (holding ?o)
    :effect (and (not (holding ?o)) (has ?p ?o) (hand-empty)))

  (:action open-container
    :parameters (?c - (either object container surface))
    :precondition (and (hand-empty) (not (open ?c)))
    :effect (open ?c))

  (:action close-container
    :parameters (?c - (either object container surface))
    :precondition (and (hand-empty) (open ?c))
    :effect (not (open ?c)))

  (:action switch-on
    :parameters (?x - (either object container surface))
    :precondition (not (on ?x))
    :effect (on ?x))

  (:action switch-off
    :parameters (?x - (either object container surface))
    :precondition (on ?x)
    :effect (not (on ?x)))

  (:action look-for
    :parameters (?x - (either object container surface person))
    :precondition ()
    :effect (found ?x))

  (:action follow
    :parameters (?p - person)
    :precondition ()
    :effect (followed ?p))

  (:action guide
    :parameters (?p - person ?r - (either region surface container))
    :precondition ()
    :effect (and (guided ?p ?r) (robot-at ?r)))

  (:action alert
    :parameters (?p - person ?m - message)
    :precondition ()
    :effect (alerted-to ?p ?m))

  (:action fill
    :parameters (?o - (either object container))
    :precondition (holding ?o)
    :effect (is-full ?o))

  (:action wash
    :parameters (?o - (either object container surface))
    :precondition ()
    :effect (is-clean ?o))

  (:action heat
    :parameters (?o - (either object container))
    :precondition ()
    :effect (and (is-hot ?o) (not (is-cold ?o))))

  (:action cool
    :parameters (?o - (either object container))
    :precondition ()
    :effect (and (is-cold ?o) (not (is-hot ?o))))

  (:action slice
    :parameters (?o - object)
    :precondition ()
    :effect (is-sliced ?o)))
