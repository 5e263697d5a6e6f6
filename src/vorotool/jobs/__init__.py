"""A job reads an input, computes, and writes what was asked for. It knows no command line."""
