"""Half shells of thin-walled plain bearings: what is drawn, its volume, and how it is read back."""
