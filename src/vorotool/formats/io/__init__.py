"""Inputs, outputs that are whole or not there, limits, room on the disk; no format is known here."""
