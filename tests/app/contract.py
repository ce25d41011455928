"""How schemathesis must send STEP, XLSX and Mathcad files; see `schemathesis.toml`."""

import schemathesis

XLSX = "application/vnd.openxmlformats-officedocument.spreadsheetml.sheet"


@schemathesis.serializer("model/step", "application/zip", "application/gzip", XLSX)
def as_bytes(context, value):
    return value if isinstance(value, bytes) else str(value).encode("utf-8", "replace")
