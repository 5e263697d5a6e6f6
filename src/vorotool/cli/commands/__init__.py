"""One module a command: its options, and which job it calls."""
