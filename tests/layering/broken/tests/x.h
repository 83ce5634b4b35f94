// Of tests.
