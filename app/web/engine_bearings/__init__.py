"""The page that sizes the bearings of an engine: fields, proposed values, and the design built from them."""
