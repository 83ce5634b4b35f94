// Not formatted.

int  two_spaces = 0;
