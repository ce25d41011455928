"""What rough faces do to a film: summits in contact, and flow factors."""
