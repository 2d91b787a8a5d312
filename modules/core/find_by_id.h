// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>

namespace alidade {

/// The first of `items` whose member `id` is this one; null for none. At once where ids count from 0 in order, as they
/// mostly do.
template <class Item>
const Item* find_by_id(std::span<const Item> items, int id) {
  const auto place = static_cast<std::size_t>(id);  // of a negative id: beyond the end
  if (place < items.size() && items[place].id == id) return &items[place];
  const auto found = std::find_if(items.begin(), items.end(), [id](const Item& item) { return item.id == id; });
  return found == items.end() ? nullptr : &*found;
}

}  // namespace alidade
