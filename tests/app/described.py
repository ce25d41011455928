"""The app as it describes itself, made once for all tests that go through its routes: it takes a second."""

from functools import cache

from app.main import create_app
from app.settings import Settings

APP = create_app(Settings())


@cache
def description():
    """The answer of /openapi.json; nobody changes it."""
    return APP.openapi()
