"""Types of parameters, and options that commands share."""
