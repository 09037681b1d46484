"""What people write on a fit: a name, tags and a note. Nothing that is identified depends on it."""
