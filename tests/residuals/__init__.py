"""Where a model fails: seen in data of the independent reference."""
