#include "engine/gpu/instance.hpp"

#include "engine/core/log.hpp"

#include <algorithm>
#include <array>
#include <cstring>

namespace helio::gpu {

namespace {

constexpr const char* kValidationLayer = "VK_LAYER_KHRONOS_validation";

std::mutex observerMutex;
std::function<void(const std::string&)> observer;

VKAPI_ATTR VkBool32 VKAPI_CALL onMessage(VkDebugUtilsMessageSeverityFlagBitsEXT severity,
                                         VkDebugUtilsMessageTypeFlagsEXT types,
                                         const VkDebugUtilsMessengerCallbackDataEXT* data, void* user) {
    const std::string message = data->pMessage ? data->pMessage : "(no text)";
    // "General" messages are the loader's own: which driver file it skipped, that a driver found no hardware.
    // They say nothing about the use of Vulkan, and a machine with many drivers installed has many of them.
    if (types == VK_DEBUG_UTILS_MESSAGE_TYPE_GENERAL_BIT_EXT) {
        log().debug("Vulkan loader: {}", message);
        return VK_FALSE;
    }
    // Images stay in layout GENERAL, which is what storage images need; where a copy reads or writes one, the
    // layer advises another layout. That is advice about speed, not a fault.
    constexpr std::int32_t kOtherLayoutIsFaster = 0x4dae5635;
    if (types == VK_DEBUG_UTILS_MESSAGE_TYPE_PERFORMANCE_BIT_EXT &&
        data->messageIdNumber == kOtherLayoutIsFaster) {
        return VK_FALSE;
    }
    const char* word = severity >= VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT ? "error" : "warning";
    static_cast<ValidationLog*>(user)->add(std::string(word) + ": " + message);
    return VK_FALSE;
}

vk::DebugUtilsMessengerCreateInfoEXT messengerInfo(ValidationLog* validationLog) {
    using Severity = vk::DebugUtilsMessageSeverityFlagBitsEXT;
    using Type = vk::DebugUtilsMessageTypeFlagBitsEXT;
    return {.messageSeverity = Severity::eWarning | Severity::eError,
            .messageType = Type::eGeneral | Type::eValidation | Type::ePerformance,
            .pfnUserCallback = onMessage,
            .pUserData = validationLog};
}

vk::raii::Context openLoader() {
    try {
        return vk::raii::Context();
    } catch (const std::exception& error) {
        throw DeviceError(std::string("the Vulkan loader cannot be opened (Debian: libvulkan1): ") +
                          error.what());
    }
}

vk::raii::Instance createInstance(const vk::raii::Context& context, ValidationLog* validationLog) {
    const std::uint32_t version = context.enumerateInstanceVersion();
    if (version < VK_API_VERSION_1_3) {
        throw DeviceError("the Vulkan loader knows version " + std::to_string(VK_API_VERSION_MAJOR(version)) +
                          "." + std::to_string(VK_API_VERSION_MINOR(version)) + "; 1.3 is needed");
    }
    const vk::ApplicationInfo application{
        .pApplicationName = "heliograph", .pEngineName = "heliograph", .apiVersion = VK_API_VERSION_1_3};
    vk::InstanceCreateInfo info{.pApplicationInfo = &application};
    if (!validationLog) {
        try {
            return vk::raii::Instance(context, info);
        } catch (const vk::IncompatibleDriverError&) {
            throw DeviceError("no Vulkan driver is installed (Debian: mesa-vulkan-drivers)");
        }
    }

    const auto layers = context.enumerateInstanceLayerProperties();
    if (std::ranges::none_of(layers, [](const vk::LayerProperties& layer) {
            return std::strcmp(layer.layerName, kValidationLayer) == 0;
        })) {
        throw DeviceError(std::string("validation was asked for, but the layer ") + kValidationLayer +
                          " is not installed (Debian: vulkan-validationlayers)");
    }
    const std::array extensions{VK_EXT_DEBUG_UTILS_EXTENSION_NAME, VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME};
    const vk::DebugUtilsMessengerCreateInfoEXT messenger = messengerInfo(validationLog);
    const vk::ValidationFeatureEnableEXT synchronization =
        vk::ValidationFeatureEnableEXT::eSynchronizationValidation;
    const vk::ValidationFeaturesEXT features{.pNext = &messenger,
                                             .enabledValidationFeatureCount = 1,
                                             .pEnabledValidationFeatures = &synchronization};
    info.pNext = &features;
    info.enabledLayerCount = 1;
    info.ppEnabledLayerNames = &kValidationLayer;
    info.enabledExtensionCount = extensions.size();
    info.ppEnabledExtensionNames = extensions.data();
    return vk::raii::Instance(context, info);
}

}  // namespace

void ValidationLog::add(std::string message) {
    log().error("Vulkan validation: {}", message);
    {
        const std::lock_guard lock(observerMutex);
        if (observer) observer(message);
    }
    const std::lock_guard lock(mutex_);
    messages_.push_back(std::move(message));
}

std::vector<std::string> ValidationLog::messages() const {
    const std::lock_guard lock(mutex_);
    return messages_;
}

void observeValidation(std::function<void(const std::string&)> newObserver) {
    const std::lock_guard lock(observerMutex);
    observer = std::move(newObserver);
}

Instance::Instance(bool validation)
    : log_(validation ? std::make_unique<ValidationLog>() : nullptr),
      context_(openLoader()),
      instance_(translateErrors("starting Vulkan", [&] { return createInstance(context_, log_.get()); })),
      messenger_(nullptr) {
    if (validation) {
        messenger_ = translateErrors("installing the validation messenger", [&] {
            return vk::raii::DebugUtilsMessengerEXT(instance_, messengerInfo(log_.get()));
        });
    }
}

std::vector<std::string> Instance::messages() const {
    return log_ ? log_->messages() : std::vector<std::string>();
}

}  // namespace helio::gpu
