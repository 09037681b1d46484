"""What is missing from fitted models: diagnoses as jobs, stored, looked at."""
