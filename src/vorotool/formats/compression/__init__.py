"""Compressions are undone here, never beyond what is asked for."""
