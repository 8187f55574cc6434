"""Grammar files: how a domain is talked about, as data (`grammars/<language>/*.yaml`)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

from polaris_nl.language.template import Parts, parse_template
from polaris_nl.language.tokens import phrase
from polaris_nl.model.data import data_folder
from polaris_nl.model.domain import Domain, Predicate
from polaris_nl.model.errors import FormatError, GrammarError, did_you_mean
from polaris_nl.model.schema import check_schema
from polaris_nl.model.yaml_lines import Lined, read_yaml

SCHEMA = "polaris-grammar/1"
_PREDICATE_WORDINGS = ("goals", "not-goals", "states", "not-states", "asks", "ellipsis")
_PREDICATE_TEXTS = (
    "fact",
    "not-fact",
    "goal",
    "not-goal",
    "event",
    "not-event",
    "name",
    "not-name",
)
_PREDICATE_LISTS = ("adjectives", "not-adjectives")
_DOMAIN_FIELDS = ("schema", "uses", "lists", "predicates", "operators", "names")


@dataclass(frozen=True, slots=True)
class Phrases:
    """How one predicate is talked about.

    Attributes:
        wordings: by kind (goals, states, ...): what is understood.
        texts: by kind (fact, goal, event, name, ...): what is said.
        adjectives: words before a noun that mean the predicate; not_adjectives: its negation.
    """

    predicate: str
    wordings: Mapping[str, tuple[Parts, ...]] = field(default_factory=dict)
    texts: Mapping[str, str] = field(default_factory=dict)
    adjectives: tuple[str, ...] = ()
    not_adjectives: tuple[str, ...] = ()


@dataclass(frozen=True)
class Common:
    """What every domain shares: see `grammars/en/common.yaml`, of which this is the content."""

    lists: Mapping[str, str]
    values: Mapping[str, object]
    language: str = "en"

    def words(self, *path: str) -> list[tuple[str, ...]]:
        """A list of phrases as words, the longest first."""
        value: object = self.values
        for key in path:
            value = value.get(key, ()) if isinstance(value, Mapping) else ()
        texts = value if isinstance(value, list) else []
        return sorted({phrase(str(t)) for t in texts}, key=lambda p: (-len(p), p))

    def templates(self, *path: str) -> tuple[Parts, ...]:
        """A list of wordings."""
        value: object = self.values
        for key in path:
            value = value.get(key, ()) if isinstance(value, Mapping) else ()
        texts = value if isinstance(value, list) else []
        return tuple(parse_template(str(t), self.lists) for t in texts)

    def mapping(self, key: str) -> Mapping[str, object]:
        """A mapping of the file."""
        value = self.values.get(key)
        return value if isinstance(value, Mapping) else {}


@dataclass(frozen=True)
class Grammar:
    """A domain's grammar with what is shared.

    Attributes:
        predicates: phrases by predicate; every predicate of the domain has an entry.
        operators: what is said for an operator, by name.
        names: (predicate of the conditional, name) for checkpoints named by their condition.
    """

    common: Common
    predicates: Mapping[str, Phrases]
    operators: Mapping[str, str]
    names: tuple[tuple[str, str], ...] = ()


def load_grammar(domain: Domain, language: str = "en") -> Grammar:
    """The grammar of a domain; a domain without a grammar file is talked about by its predicates' names.

    Raises:
        FileError: the shared grammar can't be read.
        GrammarError: a grammar file is not as it should be; file and line are named.
    """
    folder = data_folder("grammars") / language
    common = read_common(folder / "common.yaml")
    beside = domain.path.with_name("grammar.yaml") if domain.path else None
    path = folder / f"{domain.name}.yaml"
    if beside is not None and beside.is_file():
        path = beside
    if not path.is_file():
        return Grammar(common, {p.name: _plain(p, common) for p in domain.predicates.values()}, {})
    return read_grammar(path, domain, common, folder)


def read_grammar(path: Path, domain: Domain, common: Common, folder: Path) -> Grammar:
    """Reads one domain's grammar file and the files it uses.

    Raises:
        GrammarError: it is not as it should be; file and line are named.
    """
    try:
        root, _ = read_yaml(path)
        fields = root.mapping("A grammar", _DOMAIN_FIELDS)
        check_schema(
            fields["schema"].text("schema") if "schema" in fields else "", SCHEMA, "grammar"
        )
        predicates: dict[str, Phrases] = {
            p.name: _plain(p, common) for p in domain.predicates.values()
        }
        operators: dict[str, str] = {}
        for used in fields["uses"].texts("uses") if "uses" in fields else ():
            shared = read_grammar(folder / f"{used}.yaml", domain, common, folder)
            predicates.update({k: v for k, v in shared.predicates.items() if v.texts})
            operators.update(shared.operators)
        lists = {**common.lists, **_texts(fields.get("lists"))}
        own = fields.get("predicates", Lined({}, 1))
        for name, value in own.mapping("predicates", _keys(own)).items():
            if name in domain.predicates:
                predicates[name] = _phrases(name, value, lists)
            elif "uses" in fields:
                hint = did_you_mean(name, domain.predicates)
                raise FormatError(
                    f"The domain {domain.name} has no predicate {name}.{hint}", line=value.line
                )
        operators.update(
            {k: v for k, v in _texts(fields.get("operators")).items() if k in domain.operators}
        )
        return Grammar(common, predicates, operators, _names(fields.get("names")))
    except FormatError as error:
        if error.path is not None:
            raise
        raise GrammarError(error.reason, path, error.line) from error


def read_common(path: Path) -> Common:
    """Reads the grammar file that all domains share.

    Raises:
        GrammarError: it is not as it should be; file and line are named.
    """
    try:
        root, _ = read_yaml(path)
        values = {
            key: _unlined(value) for key, value in root.mapping("A grammar", _keys(root)).items()
        }
        check_schema(str(values.get("schema", "")), SCHEMA, "grammar")
        return Common(_texts(root.value.get("lists")), values, path.parent.name)
    except FormatError as error:
        raise GrammarError(error.reason, path, error.line) from error


def _phrases(name: str, value: Lined, lists: Mapping[str, str]) -> Phrases:
    fields = value.mapping(
        f"The predicate {name}", (*_PREDICATE_WORDINGS, *_PREDICATE_TEXTS, *_PREDICATE_LISTS)
    )
    wordings: dict[str, tuple[Parts, ...]] = {}
    for key in _PREDICATE_WORDINGS:
        found: list[Parts] = []
        for item in fields[key].items(key) if key in fields else ():
            try:
                found.append(parse_template(item.text("a wording"), lists))
                if key in ("states", "not-states"):
                    # A state that should be brought about: "the tray should be on the table".
                    wished = item.text("a wording").replace("<be>", "<shall-be>")
                    wordings[f"wished-{key}"] = (
                        *wordings.get(f"wished-{key}", ()),
                        parse_template(wished, lists),
                    )
            except GrammarError as error:
                raise FormatError(error.reason, line=item.line) from error
        wordings[key] = tuple(found)
    return Phrases(
        name,
        wordings,
        {key: fields[key].text(key) for key in _PREDICATE_TEXTS if key in fields},
        fields["adjectives"].texts("adjectives") if "adjectives" in fields else (),
        fields["not-adjectives"].texts("not-adjectives") if "not-adjectives" in fields else (),
    )


def _plain(predicate: Predicate, common: Common) -> Phrases:
    """Phrases made of a predicate's name or of its author's `; NL:` comment."""
    slots = [p.name.lstrip("?") for p in predicate.parameters]
    hint = predicate.hint or " ".join(
        [f"[{0}]"] * bool(slots)
        + [predicate.name.replace("-", " ").replace("_", " ")]
        + [f"[{i}]" for i in range(1, len(slots))]
    )
    text = hint
    for index, slot in enumerate(slots):
        text = text.replace(f"[{index}]", f"{{{slot}}}")
    template = parse_template(text, common.lists)
    wished = parse_template(f"(have|make|get|make sure [that]) {text}", common.lists)
    return Phrases(
        predicate.name,
        {"states": (template,), "goals": (wished,), "wished-states": (template,)},
        {},
    )


def _texts(value: Lined | None) -> dict[str, str]:
    if value is None:
        return {}
    return {key: item.text(key) for key, item in value.mapping("this", _keys(value)).items()}


def _names(value: Lined | None) -> tuple[tuple[str, str], ...]:
    found = []
    for item in value.items("names") if value is not None else ():
        fields = item.mapping("A name", ("when", "name"))
        found.append((fields["when"].text("when"), fields["name"].text("name")))
    return tuple(found)


def _keys(value: Lined) -> tuple[str, ...]:
    return tuple(value.value) if isinstance(value.value, dict) else ()


def _unlined(value: Lined) -> object:
    if isinstance(value.value, dict):
        return {key: _unlined(item) for key, item in value.value.items()}
    if isinstance(value.value, list):
        return [_unlined(item) for item in value.value]
    return value.value
