"""Engines turn values of geometry into others: a room each, and what chooses between them."""
