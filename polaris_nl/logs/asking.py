"""Questions about a run, asked in words: "why did it halt", "why did it take the else branch".

A question is taken apart into what kind of event it is about, which one of those (by the words that it
shares with the event's sentence, by "first", "last", or a time), and what is asked of it. What comes back
are events and sentences; nothing is made up that isn't in the log.
"""

from __future__ import annotations

import re

from polaris_nl.logs.replies import HELP, Answer, Events
from polaris_nl.logs.replies import Reply as Reply
from polaris_nl.logs.runs_in import only_run, run_asked, runs_in
from polaris_nl.logs.whats import (
    ended_how,
    expected,
    happened,
    happened_to,
    how_long,
    saw,
    waited,
    was_said,
    when,
)
from polaris_nl.logs.whys import why_else, why_end, why_event, why_not
from polaris_nl.model.errors import UsageError
from polaris_nl.model.wording import Wording

_ENDS = r"halt\w*|stop\w*|end\w*|fail\w*|abort\w*|give up|gave up|not finish|not done"
_IS_IT = r"^(did|has|was|is) (it|the run|the robot)"
_QUESTIONS: tuple[tuple[str, Answer], ...] = (
    (r"\belse\b|\botherwise\b|the other branch", why_else),
    (r"\b(stop|end|finish|give up)\w* waiting\b", waited),
    (rf"\bwhy\b.*\b({_ENDS})\b|\bwent wrong\b|what was the (matter|problem)", why_end),
    (r"\bwhy\b.*(n't|n’t|\bnot\b|\bnever\b)", why_not),
    (r"^how long.*\bwait|^(what|who|whom)\b.*\bwait|\bwhy\b.*\bwait", waited),
    (r"^how long", how_long),
    (r"^when\b|^at what time", when),
    (r"\bexpect", expected),
    (r"what (happened|became|was done) (to|of|with)\b", happened_to),
    (r"\bwho said|\bsaid|\btold\b|what (did|was) .*\b(say|ask|command)", was_said),
    (r"\b(see|saw|seen|perceive\w*|observe\w*)\b", saw),
    (rf"\bhow did it (end|go)|{_IS_IT}\b.*\b(done|succe\w+|{_ENDS}|finish\w*)", ended_how),
    (r"^what (happened|did (it|the robot) do|was done|has it done)|^tell me|^summ", happened),
    (r"\bwhy\b", why_event),
)  # fmt: skip


def ask(events: Events, question: str, wording: Wording | None = None) -> Reply:
    """Answers a question about a log.

    Args:
        events: of the log.
        question: in words; of several runs it is about the last, unless it says "in the first run".
        wording: how facts are put into words.

    Raises:
        UsageError: the question isn't understood, or is about nothing in this log; the text says what
            can be asked.
    """
    words = question.lower().strip(" ?!.")
    runs = len(runs_in(events))
    if runs > 1:
        events = only_run(events, run_asked(words, runs))
    for pattern, answer in _QUESTIONS:
        if re.search(pattern, words):
            reply = answer(events, words, wording)
            if reply is None:
                raise UsageError(f"Nothing in this log fits {question!r}. {HELP}")
            return reply
    raise UsageError(f"I don't know how to answer {question!r} from a log. {HELP}")
