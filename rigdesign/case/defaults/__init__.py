"""What a case leaves out: keys filled in before validation, each a marked assumption with reason and range."""
