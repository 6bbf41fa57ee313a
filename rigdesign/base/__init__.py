"""What every part uses: units, errors, files, work in parallel. Knows nothing of rigs."""
