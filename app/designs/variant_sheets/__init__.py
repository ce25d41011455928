"""The table of a design's variants as a spreadsheet: convert CSV and XLSX files to values and back.

Row 1 contains headings: `variant`, then the paths of values, such as `clearance` and `film.bearing_width`.
Row 2 contains units. Each further row is one variant. An empty cell overrides nothing. A relation is written
without its equals sign, because a spreadsheet would evaluate it; the heading of its column ends with ` =`.
Columns whose headings begin with `results:` are written and never read.
"""
