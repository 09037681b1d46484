"""Where a fitted model fails: by condition, against what moves inside the machine, and how much of it is noise."""
