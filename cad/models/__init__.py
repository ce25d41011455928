"""The built-in models, one file each: `<id>_v<version>.py`."""
