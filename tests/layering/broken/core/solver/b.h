// Knows nothing.
const auto all = std::views::iota(0, 3);
