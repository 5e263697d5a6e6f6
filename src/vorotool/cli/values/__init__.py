"""Values of options: a function each takes the text that is typed and returns the value."""
