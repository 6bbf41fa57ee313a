"""From evidence to a verdict that holds on points held out."""
