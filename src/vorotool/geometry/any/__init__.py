"""Functions of results of every kind: scaled, as tables."""
