"""Many inputs on the command line: a plan of what is done, the run, the report."""
