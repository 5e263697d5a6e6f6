"""Arguments of the library: whatever callers hold, as our values, or refused by the name of the parameter."""
