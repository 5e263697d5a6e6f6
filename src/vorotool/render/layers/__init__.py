"""Result type -> layers, one module a result."""
