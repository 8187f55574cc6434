"""Pure functions from programs, plans and states to lines of text."""
