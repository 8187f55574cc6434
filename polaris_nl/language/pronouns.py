"""What pronouns mean: the one who speaks, what was mentioned last, and what a person was told."""

from __future__ import annotations

from collections.abc import Sequence

from polaris_nl.language.entity_types import is_a
from polaris_nl.language.mention import Mention
from polaris_nl.language.scope import Meant, Misfit, Scope, Unclear
from polaris_nl.model.world import World

_PLURAL = (
    "them",
    "they",
    "these",
    "those",
    "both",
    "both of them",
    "they both",
    "them both",
    "all of them",
    "everything",
)


_PLACES = ("surface", "container")


class Pronouns:
    """Finds what pronouns mean in one world."""

    def __init__(self, world: World) -> None:
        self._world = world

    def meant(self, mention: Mention, types: Sequence[str], scope: Scope) -> Meant:
        """The entities that a pronoun means.

        Raises:
            Unclear: several fit, or none.
        """
        if mention.pronoun == "me":
            user = self._world.user
            if user is not None:
                return Meant((user.name,))
            people = [p.name for p in self._world.of_type("person")]
            return self._asked_who(people, mention, scope)
        both = mention.pronoun.endswith("both") or mention.pronoun.startswith("both")
        if (
            mention.pronoun in _PLURAL
            and len(scope.group) >= (2 if both else 1)
            and all(is_a(self._world, n, types) for n in scope.group)
        ):
            return Meant(scope.group)
        gender = {"she": "female", "her": "female", "he": "male", "him": "male"}.get(
            mention.pronoun, ""
        )
        chosen = scope.choices.get(mention.text, ())
        if chosen and all(is_a(self._world, n, types) for n in chosen):
            return Meant(chosen)
        told = self.message_told(types, scope) if tuple(types) == ("message",) else None
        if told is not None:
            return Meant((told,))
        if mention.pronoun == "there" and not self._is_place_spoken_of(types, scope):
            raise Misfit(f'"There" is no {types[0]} here.')
        fitting = [
            r
            for r in reversed(scope.referents)
            if not both
            and is_a(self._world, r, types)
            and (not gender or self._world.entities[r].gender in (gender, ""))
        ]
        if fitting:
            sure = [r for r in fitting if gender and self._world.entities[r].gender == gender]
            return Meant(((sure or fitting)[0],))
        known = [e.name for e in self._world.of_type(*types) if not gender or e.gender == gender]
        if gender and len(known) == 1:
            return Meant((known[0],))
        options = self._spoken(known) if len(known) <= 6 else []
        who = "Who" if "person" in types else "What"
        raise Unclear(f'{who} do you mean by "{mention.text}"?', options, mention.text, types)

    def _asked_who(self, people: Sequence[str], mention: Mention, scope: Scope) -> Meant:
        """The person that "me" was said to be, or a question."""
        chosen = scope.choices.get(mention.text, ())
        if len(people) == 1 or chosen:
            return Meant(chosen or tuple(people))
        options = self._spoken(people)
        raise Unclear(f'Who do you mean by "{mention.text}"?', options, mention.text, ("person",))

    def _is_place_spoken_of(self, types: Sequence[str], scope: Scope) -> bool:
        """Whether the surface or container spoken of last fits: of both, "there" is the later one."""
        places = (r for r in reversed(scope.referents) if is_a(self._world, r, _PLACES))
        latest = next(places, None)
        return latest is None or not set(types) <= set(_PLACES) or is_a(self._world, latest, types)

    def message_told(self, types: Sequence[str], scope: Scope) -> str | None:
        """The message that the person spoken of last was told: "once she acknowledges" is about hers."""
        if "message" not in types:
            return None
        people = [r for r in reversed(scope.referents) if is_a(self._world, r, ("person",))]
        return dict(scope.told).get(people[0]) if people else None

    def _spoken(self, names: Sequence[str]) -> list[str]:
        return [self._world.entities[n].spoken for n in names]
