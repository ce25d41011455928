"""A module that a forkserver preloads for a minute, as the geometry kernel seems to on a busy machine."""

import time

time.sleep(60)
