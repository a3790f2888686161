#pragma once
/** @file Builds compiler inputs for host tests: no device, no kernels. */
#include "engine/graph/compile.hpp"

#include <string>
#include <utility>
#include <vector>

namespace helio::graph {

/** Declares graphs as plain data. Resource handles are indices. */
class Builder {
public:
    static constexpr std::uint32_t serial = 7;
    Input input{.graph = serial, .resources = {}, .passes = {}, .readbacks = {}, .limits = {}};

    std::uint32_t buffer(std::string name, std::uint64_t bytes = 1024) {
        return add({.name = std::move(name), .bytes = bytes, .memoryBytes = bytes, .alignment = 64});
    }
    std::uint32_t image(std::string name, std::uint32_t width = 16, std::uint32_t height = 16) {
        return add({.name = std::move(name),
                    .kind = ResourceKind::Image,
                    .size = {width, height},
                    .format = Format::RGBA32F,
                    .memoryBytes = std::uint64_t(width) * height * 16,
                    .alignment = 64});
    }
    std::uint32_t importBuffer(std::string name, std::uint64_t bytes = 1024) {
        return add({.name = std::move(name), .imported = true, .bytes = bytes});
    }
    std::uint32_t importImage(std::string name) {
        return add({.name = std::move(name),
                    .kind = ResourceKind::Image,
                    .imported = true,
                    .size = {16, 16},
                    .format = Format::RGBA32F});
    }
    std::uint32_t add(ResourceInput resource) {
        input.resources.push_back(std::move(resource));
        return std::uint32_t(input.resources.size() - 1);
    }

    /** Fluent access declarations of the pass added last. */
    struct PassBuilder {
        Builder& owner;
        std::size_t index;
        PassBuilder& access(std::uint32_t resource, Mode mode, Usage usage, std::string binding = {},
                            Window window = {}) {
            PassInput& pass = owner.input.passes[index];
            if (binding.empty()) binding = "b" + std::to_string(pass.accesses.size());
            pass.accesses.push_back({std::move(binding), resource, serial, mode, usage, window});
            return *this;
        }
        PassBuilder& reads(std::uint32_t resource, std::string binding = {}, Window window = {}) {
            return access(resource, Mode::Read, owner.usage(resource), std::move(binding), window);
        }
        PassBuilder& writes(std::uint32_t resource, std::string binding = {}, Window window = {}) {
            return access(resource, Mode::Write, owner.usage(resource), std::move(binding), window);
        }
        PassBuilder& overwrites(std::uint32_t resource, std::string binding = {}, Window window = {}) {
            return access(resource, Mode::Overwrite, owner.usage(resource), std::move(binding), window);
        }
        PassBuilder& modifies(std::uint32_t resource, std::string binding = {}, Window window = {}) {
            return access(resource, Mode::Modify, owner.usage(resource), std::move(binding), window);
        }
        PassBuilder& indirect(std::uint32_t resource) {
            return access(resource, Mode::Read, Usage::IndirectArguments, "indirect");
        }
        PassBuilder& keep() {
            owner.input.passes[index].keep = true;
            return *this;
        }
    };
    PassBuilder pass(std::string name) {
        input.passes.push_back({.name = std::move(name), .accesses = {}});
        return {*this, input.passes.size() - 1};
    }
    void fill(std::string name, std::uint32_t resource) {
        pass(std::move(name)).access(resource, Mode::Overwrite, Usage::Fill);
    }
    /** The whole of a buffer copied onto another of the same size. */
    void copy(std::string name, std::uint32_t from, std::uint32_t to) {
        pass(std::move(name))
            .access(from, Mode::Read, Usage::CopySource)
            .access(to, Mode::Overwrite, Usage::CopyDestination);
    }
    void readback(std::uint32_t resource) { input.readbacks.push_back({resource, serial}); }
    Compiled compile() const { return graph::compile(input); }

    Usage usage(std::uint32_t resource) const {
        const bool image =
            resource < input.resources.size() && input.resources[resource].kind == ResourceKind::Image;
        return image ? Usage::StorageImage : Usage::StorageBuffer;
    }
};

}  // namespace helio::graph
