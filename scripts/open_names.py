"""Makes `grammars/en/said/DOMAIN.txt` of the requests in `tests/language/requests`: names are left open.

Only those that are understood as they were meant go in: a recogniser shouldn't expect what would be refused.
Needs no arguments; run it when requests were added.
"""

from __future__ import annotations

import sys
from pathlib import Path

import yaml

from bench.speech_meaning import Context, is_meant
from polaris_nl.language.grammar import grammar_folder
from polaris_nl.language.said import FOLDER
from polaris_nl.language.understanding import Understanding
from polaris_nl.model.world_file import load_world

ROOT = Path(__file__).parent.parent
REQUESTS = ROOT / "tests" / "language" / "requests"
HEAD = """# How things are asked for, by authors who had not seen the grammar; for the recogniser's phrases.
# Made by scripts/open_names.py of tests/language/requests. {the object}: a name with its article, or a pronoun;
# {object}: a name alone.
"""
NAMED = ("home",)
"""Names that stay, as they take no article."""
_BEFORE = "a an her his my your their some both all every that this these those two no"
BEFORE = frozenset(_BEFORE.split(" "))
"""Words after which a name has no article of its own."""


def open_names(request: str, names: dict[tuple[str, ...], str]) -> str:
    """A request with its names left open.

    Args:
        request: the words.
        names: the words of what things are called, and the things' types.
    """
    words, found = request.split(), list[str]()
    longest = max(map(len, names))
    at = 0
    while at < len(words):
        spans = (tuple(words[at : at + n]) for n in range(longest, 0, -1))
        name = next((span for span in spans if span in names and " ".join(span) not in NAMED), None)
        if name is None:
            found.append(words[at])
            at += 1
            continue
        kind = names[name]
        last = found[-1] if found else ""
        if last == "the":
            found[-1] = f"{{the {kind}}}"
        elif kind == "person" and last not in BEFORE and not last.endswith("'s"):
            found.append(f"{{the {kind}}}")
        else:
            found.append(f"{{{kind}}}")
        at += len(name)
    return " ".join(found)


def main() -> None:
    """Writes a file for each domain."""
    said: dict[str, dict[str, None]] = {}
    for file in sorted(REQUESTS.glob("*.yaml")):
        for group in yaml.safe_load(file.read_text(encoding="utf-8")):
            world = load_world(group["world"])
            names = {
                tuple(name.lower().split()): entity.type
                for entity in world.entities.values()
                for name in (entity.spoken, *entity.synonyms)
            }
            context = Context(Understanding(world), tuple(group.get("after", ())))
            for request, expected in group["say"].items():
                if is_meant(context.understood(request)[1], expected, request):
                    said.setdefault(world.domain.name, {})[open_names(request, names)] = None
    folder = grammar_folder() / FOLDER
    folder.mkdir(exist_ok=True)
    for domain, requests in said.items():
        (folder / f"{domain}.txt").write_text(HEAD + "\n".join(requests) + "\n", encoding="utf-8")
        sys.stdout.write(f"{domain}: {len(requests)} requests\n")


if __name__ == "__main__":
    main()
