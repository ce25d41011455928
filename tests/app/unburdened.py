"""The modules that a service with default settings loads, examined in a fork of the command line."""

import sys
from pathlib import Path


def served_without(data: str, *names: str) -> int:
    """Serve one request from this data folder; 1 if one of the modules is loaded then, else 0.

    FastAPI itself loads the interface of OpenTelemetry, and Pint `dask`, where these are installed: name the
    modules that send.
    """
    from fastapi.testclient import TestClient

    from app.main import create_app
    from app.settings import Settings

    app = create_app(Settings(data=Path(data)))
    with TestClient(app, base_url="http://localhost") as http:
        assert http.get("/healthz").status_code == 200
        loaded = [name for name in names if name in sys.modules]
    sys.stderr.write(f"loaded: {' '.join(loaded)}\n")
    return int(bool(loaded))
