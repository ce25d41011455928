"""Import all routes of the program in an analysed state, so that forked servers need not analyse them."""

from fastapi.routing import iter_route_contexts
from one_analysis import share_one_analysis

share_one_analysis()

from app.main import create_app  # noqa: E402 - its routes are analysed from the beginning
from app.settings import Settings  # noqa: E402

ROUTES = list(iter_route_contexts(create_app(Settings()).router.routes))
