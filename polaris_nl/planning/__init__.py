"""From a goal automaton to a branching plan, or to the reasons why not."""
