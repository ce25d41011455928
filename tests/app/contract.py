"""How STEP and XLSX files are sent, which schemathesis cannot know; `schemathesis.toml` names this file."""

import schemathesis

XLSX = "application/vnd.openxmlformats-officedocument.spreadsheetml.sheet"


@schemathesis.serializer("model/step", XLSX)
def as_bytes(context, value):
    return value if isinstance(value, bytes) else str(value).encode("utf-8", "replace")
