"""An S3 server on loopback for trials: moto, which keeps objects only in memory."""

from __future__ import annotations

import sys
from importlib.util import find_spec
from pathlib import Path

import httpx

from app.team.errors import DidNotStart, Missing
from app.team.processes import LOOPBACK, ChildProgram, free_port, listens

MISSING = "no S3 server for trials is installed: pip install 'moto[s3]' flask flask-cors"
AWS = {
    "AWS_ACCESS_KEY_ID": "trial",
    "AWS_SECRET_ACCESS_KEY": "trial",
    "AWS_REGION": "us-east-1",
    "AWS_DEFAULT_REGION": "us-east-1",
    "AWS_EC2_METADATA_DISABLED": "true",
}
"""Environment variables with the keys of the clients; the server accepts any keys."""


def is_installed() -> bool:
    """Return whether moto can be started."""
    return all(find_spec(name) for name in ("moto", "flask", "flask_cors"))


class ObjectStore:
    """An S3 server on its own port.

    Raises
    ------
    Missing
        If moto is not installed.
    """

    def __init__(self, folder: Path) -> None:
        if not is_installed():
            raise Missing(MISSING)
        self.port = free_port()
        command = [sys.executable, "-m", "moto.server", "-H", LOOPBACK, "-p", str(self.port)]
        self._process = ChildProgram("the S3 server", command, folder / "s3.log")
        try:
            self._process.until(lambda: listens(self.port))
        except DidNotStart:
            self.close()
            raise

    @property
    def endpoint(self) -> str:
        """Return the address of the server."""
        return f"http://{LOOPBACK}:{self.port}"

    @property
    def pid(self) -> int:
        """Return the id of the server's process."""
        return self._process.pid

    def create(self, bucket: str, *, versioned: bool = False) -> str:
        """Create a bucket, and return the URL for Crankwright's settings."""
        with httpx.Client(base_url=self.endpoint, trust_env=False) as http:
            http.put(f"/{bucket}").raise_for_status()
            if versioned:
                http.put(f"/{bucket}?versioning", content=_VERSIONED).raise_for_status()
        return f"s3://{bucket}"

    def send(self, number: int) -> None:
        """Send a signal to the server, such as SIGSTOP, after which it hangs but keeps its objects."""
        self._process.send(number)

    def close(self) -> None:
        """End the server, which loses all its objects."""
        self._process.stop()


_VERSIONED = (
    '<VersioningConfiguration xmlns="http://s3.amazonaws.com/doc/2006-03-01/"><Status>Enabled</Status>'
    "</VersioningConfiguration>"
)
