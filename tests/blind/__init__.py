"""Effects hidden in data of the independent reference, and what the diagnosis makes of them."""
