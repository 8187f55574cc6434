"""Grammars: how a domain is talked about, as data (`grammars/<language>/*.yaml`)."""

from __future__ import annotations

import gc
from collections.abc import Collection, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path

from polaris_nl.language.common import SCHEMA, Common, read_common
from polaris_nl.language.grammar_file import GrammarFile
from polaris_nl.language.plain_phrases import hint_line, plain_action, plain_entry
from polaris_nl.language.predicate_phrases import Phrases, check_text, read_phrases
from polaris_nl.language.said import BESIDE_SAID, FOLDER, Request, read_said
from polaris_nl.language.template import Lists
from polaris_nl.model.data import data_folder
from polaris_nl.model.domain import Domain, Operator
from polaris_nl.model.errors import GrammarError, did_you_mean
from polaris_nl.model.yaml_lines import Lined

BESIDE = "grammar.yaml"
"""The grammar file in the folder of a domain, which comes before a shipped one."""
_FIELDS = ("schema", "uses", "lists", "predicates", "operators", "names")


@dataclass(frozen=True)
class Grammar:
    """A domain's grammar with what is shared.

    Attributes:
        predicates: phrases by predicate; every predicate of the domain has an entry.
        operators: what is said for an operator, by name.
        names: (predicate of the conditional, name) for checkpoints named by their condition.
        said: how people say things, for a recogniser.
    """

    common: Common
    predicates: Mapping[str, Phrases]
    operators: Mapping[str, str]
    names: tuple[tuple[str, str], ...] = ()
    said: tuple[Request, ...] = ()


def load_grammar(domain: Domain, language: str = "en") -> Grammar:
    """The grammar of a domain; one without a grammar file is talked about by its predicates' names.

    Raises:
        FileError: the shared grammar can't be read.
        GrammarError: a grammar file is not as it should be; file and line are named.
    """
    with _uncollected():
        common = _shipped_common(language)
        path = grammar_path(domain, language)
        found = (
            plain_grammar(domain, common) if path is None else read_grammar(path, domain, common)
        )
        return replace(found, said=_said(domain, language))


def _said(domain: Domain, language: str) -> tuple[Request, ...]:
    """What people say in a domain: of the file beside it, or of the shipped one."""
    beside = domain.path.with_name(BESIDE_SAID) if domain.path else None
    if beside is not None and beside.is_file():
        return read_said(beside)
    return read_said(grammar_folder(language) / FOLDER / f"{domain.name}.txt")


@contextmanager
def _uncollected() -> Iterator[None]:
    """Without the garbage collector: all that is made here stays, and looking through it takes its time."""
    enabled = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if enabled:
            gc.enable()


@cache
def _shipped_common(language: str) -> Common:
    """What is shared, read once: it ships with the program and doesn't change under it."""
    return read_common(grammar_folder(language) / "common.yaml")


def grammar_folder(language: str = "en") -> Path:
    """Where the shipped grammars of a language are."""
    return data_folder("grammars") / language


def grammar_path(domain: Domain, language: str = "en") -> Path | None:
    """The grammar file of a domain: beside it, or shipped under its name; None where it has none."""
    beside = domain.path.with_name(BESIDE) if domain.path else None
    if beside is not None and beside.is_file():
        return beside
    shipped = grammar_folder(language) / f"{domain.name}.yaml"
    return shipped if shipped.is_file() else None


def read_grammar(
    path: Path, domain: Domain, common: Common, faults: list[GrammarError] | None = None
) -> Grammar:
    """Reads one domain's grammar file and the files it uses.

    Args:
        path: the file.
        domain: the domain that it is about.
        common: what is shared.
        faults: takes what is wrong; without it the first fault is raised.

    Raises:
        FileError: it can't be read.
        GrammarError: it is not as it should be; file and line are named.
    """
    reader = _Reader((domain,), common, faults)
    reader.read(path)
    plain = plain_grammar(domain, common, reader.predicates)
    return Grammar(
        common,
        {**plain.predicates, **reader.predicates},
        {**plain.operators, **reader.operators},
        tuple(reader.names),
    )


def plain_grammar(domain: Domain, common: Common, known: Collection[str] = ()) -> Grammar:
    """The grammar of what no file speaks of: from names and `; NL:` comments.

    Args:
        domain: the domain.
        common: what is shared.
        known: predicates that a file speaks of.
    """
    file = GrammarFile(domain.path or Path(domain.name), irregular=common.irregular)
    predicates: dict[str, Phrases] = {}
    for predicate in domain.predicates.values():
        if predicate.name in known:
            continue
        line = hint_line(domain, predicate.hint)
        fields = {
            key: Lined(said if isinstance(said, str) else [Lined(s, line) for s in said], line)
            for key, said in plain_entry(predicate).items()
        }
        predicates[predicate.name] = read_phrases(
            file, predicate, Lined(fields, line), common.lists, domain.types
        )
    operators = {o.name: plain_action(o) for o in domain.operators.values()}
    return Grammar(common, predicates, operators)


def read_shared(
    path: Path, domains: Sequence[Domain], common: Common, faults: list[GrammarError] | None = None
) -> Grammar:
    """Reads a grammar file that those of several domains use.

    Raises:
        FileError: it can't be read.
        GrammarError: it is not as it should be, or speaks of what none of the domains has.
    """
    reader = _Reader(domains, common, faults)
    reader.read(path)
    return Grammar(common, reader.predicates, reader.operators, tuple(reader.names))


class _Reader:
    """Reads the files of a grammar, the used ones first, so that a domain's own words win."""

    def __init__(
        self, domains: Sequence[Domain], common: Common, faults: list[GrammarError] | None
    ) -> None:
        self._domains = domains
        self._common = common
        self._faults = faults
        self.predicates: dict[str, Phrases] = {}
        self.operators: dict[str, str] = {}
        self.names: list[tuple[str, str]] = []

    def read(self, path: Path, shared: bool = False) -> None:
        """Reads a file; a shared one may speak of what a domain doesn't have."""
        file = GrammarFile(path, self._faults, self._common.irregular)
        fields = file.root(SCHEMA, "A grammar", _FIELDS)
        for used, line in file.items(fields.get("uses"), "uses"):
            self._read_used(file, used, line, shared)
        lists = file.lists(fields.get("lists"), self._common.lists)
        entries = file.fields(fields.get("predicates"), "predicates")
        for name, value in entries.items():
            self._read_predicate(file, name, value, lists, shared)
        for name, value in file.fields(fields.get("operators"), "operators").items():
            self._read_operator(file, name, value, shared)
        names = [] if shared else list(self._names(file, fields.get("names")))
        self.names = names or self.names

    def _read_used(self, file: GrammarFile, used: str, line: int, shared: bool) -> None:
        folder = grammar_folder(self._common.language)
        path = next(
            (
                p
                for p in (file.path.with_name(f"{used}.yaml"), folder / f"{used}.yaml")
                if p.is_file()
            ),
            None,
        )
        if shared:
            file.fault("A grammar that others use can't use one itself; take uses out.", line)
        elif path is None:
            known = {p.stem for p in folder.glob("*.yaml")} - {"common"}
            file.fault(f"There is no grammar {used} to use.{did_you_mean(used, known)}", line)
        else:
            self.read(path, shared=True)

    def _read_predicate(
        self, file: GrammarFile, name: str, value: Lined, lists: Lists, shared: bool
    ) -> None:
        domain = next((d for d in self._domains if name in d.predicates), None)
        if domain is not None:
            predicate = domain.predicates[name]
            self.predicates[name] = read_phrases(file, predicate, value, lists, domain.types)
        elif not shared:
            known = {p for d in self._domains for p in d.predicates}
            file.fault(
                f"{self._whose} has no predicate {name}.{did_you_mean(name, known)}", value.line
            )

    def _read_operator(self, file: GrammarFile, name: str, value: Lined, shared: bool) -> None:
        operator = next((d.operators[name] for d in self._domains if name in d.operators), None)
        with file.kept():
            if operator is not None:
                self.operators[name] = _operator_text(file, operator, value)
            elif not shared:
                known = {o for d in self._domains for o in d.operators}
                file.fault(
                    f"{self._whose} has no operator {name}.{did_you_mean(name, known)}", value.line
                )

    def _names(self, file: GrammarFile, value: Lined | None) -> Iterator[tuple[str, str]]:
        with file.kept():
            for item in value.items("names") if value is not None else ():
                fields = file.fields(item, "A name", ("when", "name"))
                if len(fields) < 2:
                    file.fault(
                        "A name is {when: a predicate, name: a checkpoint's name}.", item.line
                    )
                    continue
                when = fields["when"].text("when")
                known = {p for d in self._domains for p in d.predicates}
                if when not in known:
                    hint = did_you_mean(when, known)
                    file.fault(f"{self._whose} has no predicate {when}.{hint}", fields["when"].line)
                yield when, fields["name"].text("name")

    @property
    def _whose(self) -> str:
        if len(self._domains) == 1:
            return f"The domain {self._domains[0].name}"
        return "Every domain that is known here"


def _operator_text(file: GrammarFile, operator: Operator, value: Lined) -> str:
    text = value.text(operator.name)
    check_text(file, text, value.line, f"operator {operator.name}", operator.parameters)
    return text
