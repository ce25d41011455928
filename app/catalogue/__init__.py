"""The catalogue of templates, their versions, and the library of materials, oils and finishes."""
