"""What the application remembers between two keys."""

from __future__ import annotations

from dataclasses import dataclass, field

from polaris_nl.automaton.automaton import START
from polaris_nl.model.wording import Wording
from polaris_nl.planning.result import BranchingPlan
from polaris_nl.render.glyphs import Glyphs
from polaris_nl.snapshot import Snapshot
from polaris_tui.choosing import Choosing
from polaris_tui.progress import Progress
from polaris_tui.reasons import View
from polaris_tui.running import Run
from polaris_tui.scene import Reading
from polaris_tui.stepping import Steps
from polaris_tui.styles import Look
from polaris_tui.transcript import Entry, Exchange, Transcript


@dataclass
class State:
    """Everything but the program, which is the session's.

    Attributes:
        progress: of the run that goes on, or of the last one.
        read_wording: the words of the log that is open.
        before_view: what was shown before the view, to go back to.
        tree: drawn as a tree, or as an outline; None as the width says.
        picked: the checkpoint that is picked.
        purposes: why actions are there, by revision and number.
        current: the run that goes on.
        ran: the program and plan of the last run.
        robot: what runs move, such as "the simulated Stretch"; "" in the simulated world, where nothing does.
        ran_on: what the run that goes on, or the last one, moves.
        voice: whether the microphone is open, and what was heard last, in a few words.
        attached: the run that goes on, or the last one, was begun in another terminal.
        awaited_plan: the plan that the last answer was about.
        awaited: ticket, revision and older plan of an answer whose plan's news are to come.
        stopped_at: the ticket of the last thing said before a stop.
        asks_to_start: a key has asked for a run, so that a menu asks for the yes.
        kept: the program has no name yet, and is kept in a file of the application's own.
        leaving: the user has asked to quit while a run went on.
        hung_up: the terminal is gone while a run went on.
        slow: the plan has been in the making for a while.
    """

    glyphs: Glyphs
    look: Look
    wording: Wording
    progress: Progress
    transcript: Transcript = field(default_factory=Transcript)
    view: View = "program"
    before_view: View = "program"
    tree: bool | None = None
    actions: bool = True
    picked: str = START
    steps: Steps = Steps()
    purposes: dict[tuple[int, int], str] = field(default_factory=dict)
    reading: Reading | None = None
    read_wording: Wording | None = None
    choosing: Choosing = Choosing()
    current: Run | None = None
    ran: Snapshot | None = None
    robot: str = ""
    ran_on: str = ""
    voice: str = ""
    attached: bool = False
    awaited_plan: BranchingPlan | None = None
    awaited: tuple[int, int, BranchingPlan | None] | None = None
    stopped_at: int = 0
    asks_to_start: bool = False
    kept: bool = False
    leaving: bool = False
    hung_up: bool = False
    slow: bool = False

    def note(self, *entries: Entry, said: str = "") -> int:
        """Adds to what was said; returns its ticket. The same note twice in a row is said once."""
        exchanges = self.transcript.exchanges
        last = exchanges.get(self.transcript.tickets)
        if not said and entries and last is not None and last.entries == entries and not last.said:
            return self.transcript.tickets
        self.transcript = self.transcript.add(Exchange(said, entries))
        return self.transcript.tickets
