"""The line mode's runs: started, told of, commanded."""

from __future__ import annotations

import threading
from dataclasses import replace

from textual.message import Message

from polaris_nl.execution.state import HumanCommand
from polaris_nl.planning.result import BranchingPlan
from polaris_nl.snapshot import Snapshot
from polaris_tui import offering
from polaris_tui.looking import Looking
from polaris_tui.messages import Happened, RunOver
from polaris_tui.progress import Progress, advanced
from polaris_tui.remote import ATTACHED, RemoteRun
from polaris_tui.running import Running
from polaris_tui.serving import served
from polaris_tui.transcript import event_entry


class Commanding(Looking):
    """Runs programs; what happens is printed by the run's thread."""

    _over: threading.Event
    """Set while no run goes on."""

    def _sentence(self, line: str) -> None:
        """Carries a sentence out."""
        raise NotImplementedError

    def _start(self, snapshot: Snapshot, plan: BranchingPlan) -> None:
        self._scene = replace(self._scene, progress=Progress(self._session.world.initial))
        log = None
        if self._logs is not None:
            from polaris_nl.logs.paths import new_log_path

            log = new_log_path(self._session.world.name, self._logs)
        self._over.clear()
        self._session.running = True
        before, profile = self._session.past, self._profile
        run = Running(
            self._session, snapshot, plan, self._happened, self._live, log, before, profile
        )
        if self._places.listens_at is not None:
            run.tell, trouble = served(run, self._session, self._places.listens_at, self._happened)
            if trouble:
                self._say(trouble, "! ")
        self._current = run
        run.start()
        if profile is not None:
            self._say(f"I'm looking for {profile.title}. Nothing has been told to move.")

    def _attach(self) -> None:
        """Tells of a run of another terminal, which can be stopped, paused and told things from here."""
        run = RemoteRun(self._places.elsewhere[-1], self._happened)
        self._places = replace(self._places, elsewhere=self._places.elsewhere[:-1])
        self._scene = replace(self._scene, progress=Progress(self._session.world.initial))
        self._current = run
        self._over.clear()
        self._say(ATTACHED)
        run.start()

    def _happened(self, message: Message) -> None:
        """In the run's thread: prints what happens."""
        current = self._current
        if isinstance(message, Happened) and current is not None:
            progress = advanced(self._scene.progress, message.event, current.plan)
            self._scene = replace(self._scene, progress=progress)
            seconds = message.event.time - (progress.started or message.event.time)
            entry = event_entry(message.event, seconds, self._scene.glyphs)
            if entry is not None:
                self._say(entry.text, entry.lead)
        elif isinstance(message, RunOver):
            self._current = None
            self._session.running = False
            for entry in message.entries:
                self._say(entry.text, entry.lead)
            self._over.set()

    def _order(self, order: str) -> None:
        if self._current is None:
            self._sentence(order)
        elif order == "pause" and self._scene.progress.activity == "paused":
            self._current.command(HumanCommand("resume"))
        elif order == "pause":
            self._current.command(HumanCommand("pause"))
        else:
            self._current.command(HumanCommand("resume" if order == "resume" else "stop"))

    def _tell(self, about: str) -> None:
        waiting, wording = self._scene.progress.waiting, self._session.wording
        if about and self._current is not None:
            self._current.command(HumanCommand("happened", waiting[int(about) - 1]))
            return
        self._follow(offering.tell_menu(waiting, wording))
