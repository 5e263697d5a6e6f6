"""The command line: the program, its exit codes, and rooms for commands, options and batches."""
