"""The OpenAPI document of the app, created once for all tests that use its routes: it takes a second."""

from functools import cache

from app.main import create_app
from app.settings import Settings

APP = create_app(Settings())


@cache
def description():
    """The answer of /openapi.json; nobody changes it."""
    return APP.openapi()
