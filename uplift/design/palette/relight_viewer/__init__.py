"""The light dial: a page that puts any mix of a palette's lights on a picture of its materials, at once."""
