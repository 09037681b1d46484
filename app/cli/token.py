"""`servoident token`: draw a token for the service."""


def token() -> None:
    """Print a new random token. Give it to the service and its clients as SERVOIDENT_TOKEN."""
    import secrets

    print(secrets.token_urlsafe(24))
