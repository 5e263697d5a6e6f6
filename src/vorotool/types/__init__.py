"""Public values and how they declare what they hold."""
