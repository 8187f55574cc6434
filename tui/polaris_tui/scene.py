"""All that the panes show, as one value."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from polaris_nl.automaton.automaton import START
from polaris_nl.model.state import Mutexes
from polaris_nl.model.wording import Wording
from polaris_nl.model.world import World
from polaris_nl.render.glyphs import Glyphs
from polaris_nl.render.timeline import Stop, branch_stops
from polaris_nl.snapshot import Snapshot
from polaris_tui.actions import Keymap
from polaris_tui.progress import RUNS, Progress
from polaris_tui.reasons import Situation
from polaris_tui.stepping import Steps

if TYPE_CHECKING:
    from polaris_tui.replay import Replay


@dataclass(frozen=True, slots=True)
class Reading:
    """Where the user is in a log.

    Attributes:
        number: the event, counted from 1.
        words: the filter, or "".
        below: what stands below the events: details, expected beside perceived, or what led here.
    """

    replay: Replay
    number: int = 1
    words: str = ""
    below: str = "event"


@dataclass(frozen=True, slots=True)
class Scene:
    """All that the panes show, but the answers.

    Attributes:
        file: the program file's name, or what is to be known where there is none.
        snapshot: program and plan; in a run, those that are carried out.
        wording: words for goals and actions.
        progress: how far a run is.
        keymap: the user's keys.
        now: what can be done now.
        mutexes: what excludes what, once the planner is loaded.
        tree: the program is drawn as a tree.
        actions: the outline shows the plan's actions.
        steps: the place in the plan step by step.
        purpose: why the step that is picked is there, or "" while that is worked out.
        reading: the place in a log, or None.
        picked: the checkpoint that is picked.
        stepping: the map is of the step that is picked.
        attached: the run was begun in another terminal.
        voice: whether the microphone is open, and what was heard last, in a few words.
        robot: what the run that is shown moves, or the next one; "" in the simulated world.
        slow: the plan has been in the making for so long that the screen says so.
    """

    world: World
    file: str
    snapshot: Snapshot
    wording: Wording
    progress: Progress
    glyphs: Glyphs
    keymap: Keymap = field(default_factory=Keymap)
    now: Situation = Situation()
    mutexes: Mutexes = Mutexes()
    tree: bool = False
    actions: bool = True
    picked: str = START
    steps: Steps = Steps()
    purpose: str = ""
    reading: Reading | None = None
    slow: bool = False
    stepping: bool = False
    attached: bool = False
    robot: str = ""
    voice: str = ""

    @property
    def running(self) -> bool:
        """Whether a run goes on."""
        return self.progress.activity in RUNS

    def stops(self) -> tuple[Stop, ...]:
        """The stops of the branch that is stepped through."""
        plan = self.snapshot.plan
        if plan is None:
            return ()
        return branch_stops(self.snapshot.automaton, plan, self.steps.leaf, self.wording)
