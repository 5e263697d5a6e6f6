"""Pages that move: HTML, and plots."""
