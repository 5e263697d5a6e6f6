"""How far two shapes are apart: values."""
