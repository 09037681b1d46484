"""From a test matrix to identified parameters: search, polish, uncertainty, result."""
