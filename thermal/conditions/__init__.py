"""What happens at the surfaces and between the bodies of a housing."""
