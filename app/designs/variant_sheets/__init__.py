"""The table of a design's variants as a spreadsheet: CSV and XLSX files ↔ values by variant and place.

Row 1 holds headings: `variant`, then places such as `clearance` and `film.bearing_width`. Row 2 holds units.
Each further row is one variant. An empty cell overrides nothing. A relation stands in a column whose heading
ends with ` =`, without the equals sign, because a spreadsheet would evaluate it. Columns whose headings begin
with `results:` are written and never read.
"""
