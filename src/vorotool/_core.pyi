"""Types of the compiled core (private)."""
