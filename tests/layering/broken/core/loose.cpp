// Lies in no room.
