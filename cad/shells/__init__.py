"""Half shells of thin-walled plain bearings: the drawn shape, its volume, and how it is read back."""
