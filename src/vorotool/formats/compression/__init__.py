"""Undoing compressions, up to a limit."""
