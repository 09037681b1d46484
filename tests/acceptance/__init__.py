"""What the program promises, held against the independent reference and measured data."""
