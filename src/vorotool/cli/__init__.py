"""The command line: one file a command, one registry of shared options."""
