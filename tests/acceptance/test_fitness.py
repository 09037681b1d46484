"""The fast fitness is eq. (17), held against the time domain of the independent reference, above all at the truth."""
