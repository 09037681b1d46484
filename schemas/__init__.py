"""The contract's messages, pydantic only."""
