"""One module a command: its options and its call of a job."""
