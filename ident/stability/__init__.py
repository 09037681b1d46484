"""Whether a loop is stable: its mode, which part of it makes the mode grow, what would make it stable again."""
