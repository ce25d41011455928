"""The static film of a journal bearing: closed forms, fits, maps, full solutions."""
