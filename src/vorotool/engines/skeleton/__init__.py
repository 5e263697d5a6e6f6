"""Diagram -> skeleton; site distances; its check."""
