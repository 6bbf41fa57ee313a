"""The commands, one module each; importing a module adds its command to the application."""
