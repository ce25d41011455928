"""Names and times of stored things."""

import secrets
import time
from datetime import UTC, datetime


def new_id() -> str:
    """Return a new identity of 24 hexadecimal digits; later ones sort after earlier ones."""
    return f"{time.time_ns() // 1000:014x}{secrets.token_hex(5)}"


def now() -> str:
    """Return the present time in UTC as text."""
    return as_text(datetime.now(UTC))


def as_text(moment: datetime) -> str:
    """Return a moment in UTC as ISO 8601 text of constant length: text order is time order."""
    return moment.isoformat(timespec="microseconds").replace("+00:00", "Z")
