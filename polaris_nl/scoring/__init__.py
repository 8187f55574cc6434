"""How good a program is: the paper's feasibility and runtime scores, and its human effort (docs/score.md)."""
