// Knows nothing.
