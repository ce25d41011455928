"""Half shells of thin-walled plain bearings: shape, volume, and readback."""
