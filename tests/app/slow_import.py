"""A module whose import takes a minute, like the geometry kernel on a busy machine, for a fork server."""

import time

time.sleep(60)
