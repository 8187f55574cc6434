"""The goal automaton: values, edits, undo, validation and program files."""
