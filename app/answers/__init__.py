"""From requirements to the values that meet them, with the proof."""
