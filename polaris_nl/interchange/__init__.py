"""Programs in other forms: ISL, the goal-automaton language of the authors of the paper."""
