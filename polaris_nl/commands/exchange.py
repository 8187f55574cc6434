"""`export` and `import`: programs in other forms."""

from __future__ import annotations

from argparse import Namespace

from polaris_nl.automaton.automaton import Automaton
from polaris_nl.commands.common import opened, print_json
from polaris_nl.model.errors import PolarisError
from polaris_nl.model.text import listed
from polaris_nl.model.wording import Wording
from polaris_nl.render.glyphs import plain
from polaris_nl.session import Session

ISL_LATER = (
    "ISL isn't read or written yet; it comes in a later version. Export works to mermaid and dot."
)


def run(arguments: Namespace) -> int:
    """Exports to Mermaid or DOT; ISL is said to come later."""
    if arguments.command == "import" or arguments.to == "isl":
        raise PolarisError(ISL_LATER)
    program, world = opened(arguments)
    with Session(world, program.automaton) as session:
        text = (mermaid if arguments.to == "mermaid" else dot)(program.automaton, session.wording)
    if arguments.json:
        print_json({"form": arguments.to, "text": text})
    else:
        print(text)
    return 0


def mermaid(automaton: Automaton, wording: Wording) -> str:
    """A Mermaid flow chart."""
    lines = ["flowchart TD"]
    for checkpoint in automaton.checkpoints.values():
        goals = listed([wording.goal(g) for g in checkpoint.goals])
        label = f"{checkpoint.name}<br/>{goals}" if goals else checkpoint.name
        lines.append(f'  {checkpoint.id}["{_quoted(label)}"]')
    for transition in automaton.transitions.values():
        label = listed([wording.event(x) for x in transition.when])
        if not label and automaton.is_else(transition.id):
            label = "otherwise"
        arrow = f'-->|"{_quoted(label)}"|' if label else "-->"
        lines.append(f"  {transition.source} {arrow} {transition.target}")
    return "\n".join(lines)


def dot(automaton: Automaton, wording: Wording) -> str:
    """A Graphviz digraph."""
    lines = ["digraph program {", "  node [shape=box];"]
    for checkpoint in automaton.checkpoints.values():
        goals = listed([wording.goal(g) for g in checkpoint.goals])
        label = f"{checkpoint.name}\\n{goals}" if goals else checkpoint.name
        lines.append(f'  {checkpoint.id} [label="{_quoted(label, dot=True)}"];')
    for transition in automaton.transitions.values():
        label = listed([wording.event(x) for x in transition.when])
        if not label and automaton.is_else(transition.id):
            label = "otherwise"
        lines.append(
            f'  {transition.source} -> {transition.target} [label="{_quoted(label, dot=True)}"];'
        )
    return "\n".join([*lines, "}"])


def _quoted(text: str, dot: bool = False) -> str:
    text = plain(text)
    return text.replace('"', '\\"') if dot else text.replace('"', "#quot;")
