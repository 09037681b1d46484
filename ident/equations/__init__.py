"""Text in, equations out: what a formula may say, its parts, tables of values, mathematics for the page."""
