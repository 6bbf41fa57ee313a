"""What the points of a study say: margins by check and group, where they hold, what limits them."""
