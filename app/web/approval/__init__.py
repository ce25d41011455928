"""The forms of an approval, and the part of a page that shows its state."""
