"""Logs: events to MCAP and back, recovery of cut-off files, and review."""
