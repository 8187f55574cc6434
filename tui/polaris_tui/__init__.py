"""The terminal application of Polaris NL: one more face of a session."""
