"""How a STEP file is sent, which schemathesis cannot know; `schemathesis.toml` names this file."""

import schemathesis


@schemathesis.serializer("model/step")
def as_bytes(context, value):
    return value if isinstance(value, bytes) else str(value).encode("utf-8", "replace")
