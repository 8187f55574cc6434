"""Checks grammar files: all that is wrong with one, and wordings that get in each other's way."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import lru_cache
from pathlib import Path

from polaris_nl.language import common as shared
from polaris_nl.language import intents
from polaris_nl.language.common import Common, read_common
from polaris_nl.language.grammar import (
    BESIDE,
    grammar_folder,
    grammar_path,
    plain_grammar,
    read_grammar,
    read_shared,
)
from polaris_nl.language.overlaps import intent_overlaps, predicate_overlaps
from polaris_nl.language.plain_phrases import hint_faults
from polaris_nl.model.data import shipped_domains
from polaris_nl.model.domain import Domain
from polaris_nl.model.errors import GrammarError
from polaris_nl.model.pddl import read_domain

COMMON = "common.yaml"
SCHEMAS = (shared.SCHEMA, intents.SCHEMA)
"""The schemas of the files that are checked here."""


@dataclass
class Findings:
    """What a check found.

    Attributes:
        what: the kind of file.
        errors: what keeps the file from being used.
        warnings: what is allowed, but not likely to be meant.
    """

    what: str
    errors: list[GrammarError] = field(default_factory=list)
    warnings: list[GrammarError] = field(default_factory=list)


def check_grammar_file(path: Path) -> Findings:
    """Checks a grammar file of any kind: shared, of an intent, of a domain, or used by several.

    Raises:
        FileError: it, or what it needs, can't be read.
    """
    if path.name == COMMON:
        return _check_common(path)
    if path.parent.name == intents.INTENTS:
        return _check_intent(path)
    domain = _domain_of(path)
    if domain is not None:
        return _of_file(_check_for(path, [domain]), path)
    return _of_file(_check_for(path, [read_domain(p) for p in shipped_domains().values()]), path)


def check_domain(domain: Domain) -> Findings:
    """Checks how a domain is talked about, by its grammar file or by its comments.

    Raises:
        FileError: what it needs can't be read.
    """
    path = grammar_path(domain)
    if path is not None:
        return _check_for(path, [domain])
    found = Findings("no grammar", list(hint_faults(domain)))
    if not found.errors:
        common = read_common(grammar_folder() / COMMON)
        found.warnings.extend(predicate_overlaps(plain_grammar(domain, common), domain))
    return found


def _check_common(path: Path) -> Findings:
    found = Findings("the shared grammar")
    found.errors.extend(_read(path)[1])
    found.warnings.extend(_intent_warnings(path))
    return found


def _check_intent(path: Path) -> Findings:
    found = Findings("an intent")
    beside = path.parent.with_name(COMMON)
    shared_file = beside if beside.is_file() else grammar_folder() / COMMON
    intents.read_intent(path, _read(shared_file)[0].lists, found.errors)
    found.warnings.extend(_intent_warnings(shared_file))
    return _of_file(found, path)


_Read = tuple[Common, tuple[GrammarError, ...]]


def _read(path: Path) -> _Read:
    """What is shared, and its faults; read again only where a file has changed."""
    return _read_once(path, _stamp(path))


def _intent_warnings(path: Path) -> tuple[GrammarError, ...]:
    return _overlaps_once(path, _stamp(path))


def _stamp(path: Path) -> tuple[int, ...]:
    files = (path, *sorted(path.with_name(intents.INTENTS).glob("*.yaml")))
    return tuple(file.stat().st_mtime_ns for file in files if file.is_file())


@lru_cache(maxsize=4)
def _read_once(path: Path, stamp: tuple[int, ...]) -> _Read:
    faults: list[GrammarError] = []
    return read_common(path, faults), tuple(faults)


@lru_cache(maxsize=4)
def _overlaps_once(path: Path, stamp: tuple[int, ...]) -> tuple[GrammarError, ...]:
    return tuple(intent_overlaps(_read(path)[0]))


def _check_for(path: Path, domains: Sequence[Domain]) -> Findings:
    """Checks a grammar for the one domain that it is about, or for all that may use it."""
    found = Findings("a grammar" if len(domains) == 1 else "a shared grammar")
    common = _common_for(path)
    if len(domains) == 1:
        grammar = read_grammar(path, domains[0], common, found.errors)
    else:
        grammar = read_shared(path, domains, common, found.errors)
    for domain in domains:
        for warning in predicate_overlaps(grammar, domain):
            if str(warning) not in map(str, found.warnings):
                found.warnings.append(warning)
    return found


def _common_for(path: Path) -> Common:
    """What is shared by the grammars beside a file, or by the shipped ones.

    Raises:
        GrammarError: it has a fault.
    """
    beside = path.with_name(COMMON)
    common, faults = _read(beside if beside.is_file() else grammar_folder() / COMMON)
    for fault in faults:
        raise fault
    return common


def _domain_of(path: Path) -> Domain | None:
    """The domain that a grammar file is about: the one beside it, or a shipped one by its name."""
    beside = sorted(path.parent.glob("*.pddl"))
    if beside and (path.name == BESIDE or len(beside) == 1):
        return read_domain(beside[0])
    known = shipped_domains()
    return read_domain(known[path.stem]) if path.stem in known else None


def _of_file(found: Findings, path: Path) -> Findings:
    """The findings without warnings about other files."""
    kept = [w for w in found.warnings if w.path is not None and w.path.resolve() == path.resolve()]
    return Findings(found.what, found.errors, kept)
