"""The pages: server-rendered, readable without scripts, made live by small ES modules."""

from app.pages.endpoints import router

__all__ = ["router"]
