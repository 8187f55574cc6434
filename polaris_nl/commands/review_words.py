"""The words of a log's own world, for facts and actions."""

from __future__ import annotations

from functools import cached_property
from typing import Any, cast

from polaris_nl.logs.reader import Log
from polaris_nl.model.wording import Wording


class _Words:
    """The words of a log's world, loaded when the first of them is needed: that takes a second or two."""

    def __init__(self, log: Log) -> None:
        self._log = log

    @cached_property
    def _own(self) -> Wording:
        from polaris_nl.language.grammar import load_grammar
        from polaris_nl.language.wording import GrammarWording
        from polaris_nl.replays import world_of

        world = world_of(self._log)
        return GrammarWording(world, load_grammar(world.domain))

    def __getattr__(self, name: str) -> Any:
        return getattr(self._own, name)


def words_of(log: Log) -> Wording | None:
    """How the log's world is put into words; None where the log holds no world."""
    return cast(Wording, _Words(log)) if "world.yaml" in log.attachments else None
